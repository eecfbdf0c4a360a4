"""Picture of the last result that the example of a docstring computes, drawn by its method `plot`."""

import ast
import contextlib
import inspect
from doctest import DocTestParser
from importlib import import_module

import rocking
from rocking.model.validation import Refusal


class Calls(ast.NodeTransformer):
    """Change of code: the value of each call is passed to a function `seen`, which returns it."""

    def visit_Call(self, node):
        self.generic_visit(node)
        return ast.Call(ast.Name("seen", ast.Load()), [node], [])


def results(name):
    """Run the example of a public name, and list the results that its calls return."""
    module, _, short = name.rpartition(".")
    value = getattr(import_module(module), short)
    code = "".join(each.source for each in DocTestParser().get_examples(inspect.getdoc(value)))
    found = []

    def seen(value):
        found.append(value)
        return value

    tree = ast.fix_missing_locations(Calls().visit(ast.parse(code)))
    names = vars(import_module(inspect.unwrap(value).__module__)) | {"seen": seen}
    with contextlib.redirect_stdout(None):
        exec(compile(tree, name, "exec"), names)
    return [value for value in found if getattr(value, "PLOT", "") and not isinstance(value, type)]


def draw(name, file):
    """Write the picture of the last result of an example; nothing if there is none, or if it cannot be drawn."""
    for result in results(name)[-1:]:
        with contextlib.suppress(Refusal):
            drawn = result.plot()
            rocking.plot.save(drawn[0] if isinstance(drawn, tuple) else drawn, file)
