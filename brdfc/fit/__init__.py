"""Measured reflectance: read, summarised, taken from photographs, fitted."""
