"""Parts of pictures: styles, axes, legends, scenes and files."""
