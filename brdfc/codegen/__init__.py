"""Expressions to calculator programs: operators chosen, then put in order on the stack."""
