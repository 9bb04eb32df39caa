"""One file a format; brdfc/fit/formats.py lists them."""
