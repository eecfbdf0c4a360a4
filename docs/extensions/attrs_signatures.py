"""Signatures of attrs classes: defaults are shown as values, because the source of a generated `__init__` names none."""

GENERATED = "attr_dict["


def restore(app, obj, bound_method):
    """Remove the signature that `autodoc_preserve_defaults` made of the source of a generated `__init__`."""
    if GENERATED in str(getattr(obj, "__dict__", {}).get("__signature__", "")):
        del obj.__signature__


def setup(app):
    app.connect("autodoc-before-process-signature", restore, priority=900)  # after that of autodoc
