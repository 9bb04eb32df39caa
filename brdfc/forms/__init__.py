"""Equivalent forms of a formula: named rules with conditions, and the search through them."""
