"""What a scene needs of a model, and what may be left out for it."""
