"""A model's formulas as exact expressions: built, specialised, bounded, guarded."""
