"""Pictures: what each choice costs in speed and in accuracy."""
