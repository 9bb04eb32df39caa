"""Images of coefficients in, images of colours out; row bands, never the whole image in memory."""
