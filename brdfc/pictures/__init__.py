"""From models, profiles and measured points to what pictures show."""
