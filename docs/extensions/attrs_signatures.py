"""Signatures of attrs classes: defaults are shown as values, because the source of a generated `__init__` names none."""

import inspect

GENERATED = "attr_dict["


def restored(app, what, name, obj, options, signature, returned):
    """Return the signature of an attrs class with the values of its defaults; leave any other signature as it is."""
    if what != "class" or GENERATED not in (signature or ""):
        return None
    found = inspect.signature(obj)
    parameters = [one.replace(annotation=one.empty) for one in found.parameters.values()]
    return str(found.replace(parameters=parameters, return_annotation=found.empty)), returned


def setup(app):
    app.connect("autodoc-process-signature", restored)
