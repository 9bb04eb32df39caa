"""What formulas can be at most over a whole domain, proved by interval arithmetic."""
