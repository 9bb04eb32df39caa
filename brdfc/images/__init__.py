"""Images of coefficients in, images of colours out; in windows, never the whole image in memory."""
