"""Run calculator programs on arrays of pixels."""
