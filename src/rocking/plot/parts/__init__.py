"""Parts of figures: styles, axes, legends, scenes and files."""
