"""Colour: white points, differences, pictures; thin over colour-science."""
