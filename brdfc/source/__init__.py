"""Text with places: spans, diagnostics, the errors a user can meet, and how they are drawn."""
