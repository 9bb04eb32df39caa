"""A program and its channels as ICC.2 profiles."""
