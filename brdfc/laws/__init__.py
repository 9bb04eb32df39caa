"""The laws of a reflectance model, sought to be broken over its whole domain."""
