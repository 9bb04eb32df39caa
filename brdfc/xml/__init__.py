"""Profiles as the reference's XML, written and read."""
