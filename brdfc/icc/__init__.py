"""The container: an ICC profile's header, tags and tag types; read, write and validate."""
