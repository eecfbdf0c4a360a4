"""Taylor series of an arc of the full block, as straight-line code for a fixed order.

With w = alpha (1 - u), on side sigma,

    w'' = sin w + sigma alpha A(t) cos w.

S = sin w and C = cos w obey S' = w' C and C' = -w' S. A cosine A = g, with H = A sin(phase), obeys g' = -Omega H and H' = Omega g.
So the coefficients follow one from another. Each sum is in two parts, which halves its latency. The source of the kernels is
made here, because a loop over an array costs as much as the series itself.
"""

from collections.abc import Callable
from typing import Any

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit

ORDER = 20


def total(terms: list[str]) -> str:
    """Return the source of a sum, in two parts."""
    halves = [" + ".join(terms[k::2]) for k in range(2)]
    return f"({halves[0]}) + ({halves[1]})" if halves[1] else halves[0]


def lines_of_block(forced: Callable[[int], list[str]]) -> list[str]:
    """Return the source lines that compute w2, w3, ... from w0, w1, s0 and c0; ``forced`` gives the terms of the forcing."""
    lines = ["d1 = w1"]
    for k in range(ORDER - 1):
        if k:
            here = [f"d{j} * {{}}{k - j}" for j in range(1, k + 1)]
            lines.append(f"s{k} = ({total([term.format('c') for term in here])}) * {1.0 / k!r}")
            lines.append(f"c{k} = ({total([term.format('s') for term in here])}) * {-1.0 / k!r}")
        terms = total([f"s{k}", *forced(k)])
        lines.append(f"w{k + 2} = ({terms}) * {1.0 / ((k + 1) * (k + 2))!r}")
        lines.append(f"d{k + 2} = {k + 2}.0 * w{k + 2}")
    return lines


def kernel(name: str, arguments: str, lines: list[str], document: str) -> Any:
    """Return a kernel with these source lines."""
    body = "\n".join(f"    {line}" for line in lines)
    scope: dict[str, Any] = {"__name__": __name__}
    exec(f'def {name}({arguments}):\n    """{document}"""\n{body}\n', scope)
    return njit(**INTERNAL)(scope[name])


COEFFICIENTS = "(" + ", ".join(f"w{k} * scale" for k in range(2, ORDER + 1)) + ")"


def cosine_lines() -> list[str]:
    """Return the source of the series under a cosine."""
    lines = []
    for k in range(1, ORDER - 1):
        lines += [
            f"g{k} = h{k - 1} * (frequency * {-1.0 / k!r})",
            f"h{k} = g{k - 1} * (frequency * {1.0 / k!r})",
        ]
    lines += lines_of_block(lambda k: cosine_terms("c", k))
    return lines


def linear_lines() -> list[str]:
    """Return the source of the series under a + rate t."""
    return lines_of_block(lambda k: linear_terms("c", k))


def cosine_terms(factor: str, k: int) -> list[str]:
    """Return the terms of coefficient k of the product of a cosine and a ``factor``, s or c."""
    return [f"g{j} * {factor}{k - j}" for j in range(k + 1)]


def linear_terms(factor: str, k: int) -> list[str]:
    """Return the terms of coefficient k of the product of a + rate t and a ``factor``, s or c."""
    return [f"g0 * {factor}{k}"] + ([f"rate * {factor}{k - 1}"] if k else [])


def transfer_lines(forced: Callable[[str, int], list[str]]) -> list[str]:
    """Return the source of two solutions of x'' = (cos w - sigma alpha A sin w) x, the equation of small perturbations.

    x starts with (x, x') = (1, 0), y with (0, 1). ``forced`` gives the terms of products with the forcing.
    """
    lines = ["x0, x1, y0, y1 = 1.0, 0.0, 0.0, 1.0"]
    for k in range(ORDER - 1):
        lines.append(f"q{k} = c{k} - ({total(forced('s', k))})")
        for name in "xy":
            terms = total([f"q{j} * {name}{k - j}" for j in range(k + 1)])
            lines.append(f"{name}{k + 2} = ({terms}) * {1.0 / ((k + 1) * (k + 2))!r}")
    both = ", ".join("(" + ", ".join(f"{name}{k}" for k in range(2, ORDER + 1)) + ")" for name in "xy")
    return [*lines, f"return {both}"]


cosine_series = kernel(
    "cosine_series",
    "w1, s0, c0, scale, g0, h0, frequency",
    [*cosine_lines(), f"return {COEFFICIENTS}"],
    "Return w2, w3, ... under a cosine, times a scale.",
)
linear_series = kernel(
    "linear_series",
    "w1, s0, c0, scale, g0, rate",
    [*linear_lines(), f"return {COEFFICIENTS}"],
    "Return w2, w3, ... under an acceleration that is linear in time, times a scale.",
)
cosine_transfer = kernel(
    "cosine_transfer",
    "w1, s0, c0, g0, h0, frequency",
    [*cosine_lines(), *transfer_lines(cosine_terms)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` under a cosine.",
)
linear_transfer = kernel(
    "linear_transfer",
    "w1, s0, c0, g0, rate",
    [*linear_lines(), *transfer_lines(linear_terms)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` under a linear acceleration.",
)


def polynomial_lines(first: int) -> list[str]:
    """Return the source of the value and the derivative of the terms from t^``first`` on, divided by t^``first``."""
    names = ["a", "b", *(f"w[{k}]" for k in range(ORDER - 1))]
    lines = [f"p, q = {names[ORDER]}, 0.0"]
    for k in range(ORDER - 1, first - 1, -1):
        lines += ["q = q * t + p", f"p = p * t + {names[k]}"]
    return [*lines, "return p, q"]


def divided(first: int) -> Any:
    """Return the kernel of a + b t + w2 t^2 + ..., divided by t^``first``: the known zeros at the start are taken out exactly."""
    document = f"Return the polynomial divided by t^{first}, and its derivative."
    return kernel(f"divided_{first}", "a, b, w, t", polynomial_lines(first), document)


def bend_lines(first: int) -> list[str]:
    """Return the source of the bound of the second derivative of ``divided`` on [0, h]."""
    names = ["a", "b", *(f"w[{k}]" for k in range(ORDER - 1))]
    orders = range(ORDER, first + 1, -1)
    terms = [f"p = p * h + {float((k - first) * (k - first - 1))!r} * abs({names[k]})" for k in orders]
    return ["p = 0.0", *terms, "return p"]


def bend(first: int) -> Any:
    """Return the kernel that bounds the second derivative of ``divided`` on [0, h]."""
    document = f"Bound the second derivative of the polynomial divided by t^{first}."
    return kernel(f"bend_{first}", "a, b, w, h", bend_lines(first), document)


divided_0, divided_1, divided_2, divided_3 = (divided(first) for first in range(4))
bend_0, bend_1, bend_2, bend_3 = (bend(first) for first in range(4))


def size_lines() -> list[str]:
    """Return the source of the sums of |w_k| r^k from k = 1 on, and of k (k - 1) |w_k| r^(k - 2)."""
    lines = ["y, z = 0.0, 0.0"]
    for k in range(ORDER, 1, -1):
        lines += [f"y = y * r + abs(w[{k - 2}])", f"z = z * r + {float(k * (k - 1))!r} * abs(w[{k - 2}])"]
    return [*lines, "return (y * r + abs(b)) * r, z"]


sizes = kernel(
    "sizes", "b, w, r", size_lines(), "Return the sums of |w_k| r^k and of k (k - 1) |w_k| r^(k - 2)."
)


def derivative_lines() -> list[str]:
    """Return the source of the coefficients of the derivative, of the same form, times a sign."""
    later = ", ".join(f"sign * ({k + 1}.0 * w[{k - 1}])" for k in range(2, ORDER))
    return [f"return sign * b, sign * (2.0 * w[0]), ({later}, 0.0)"]


negative = kernel(
    "negative",
    "w",
    [f"return {', '.join(f'-w[{k}]' for k in range(ORDER - 1))}"],
    "Return the coefficients times -1.",
)
derivative = kernel(
    "derivative",
    "b, w, sign",
    derivative_lines(),
    "Return the derivative of a + b t + w2 t^2 + ..., times a sign, in this form.",
)
