"""The language: `.brdf` text to a checked `Model`. `brdfc.lang.load` is the way in."""
