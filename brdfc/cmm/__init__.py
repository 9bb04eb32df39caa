"""Run chains of profiles."""
