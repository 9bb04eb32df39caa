"""The calculator as a machine: its operators, programs, text, bytes and static verifier."""
