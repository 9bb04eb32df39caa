"""How good a program is: samples of its domain, the truth, and the error."""
