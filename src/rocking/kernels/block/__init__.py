"""The blocks: equations of motion, restitution, impacts at the base and at braces, chattering, rest."""
