"""Taylor series of an arc of the full block, as straight-line code for a fixed order.

With w = alpha (1 - u), on side sigma,

    w'' = sin w + sigma alpha A(t) cos w.

On a base that also moves vertically sin w is multiplied by the weight, f0 + lift t. A restrainer (``arc.full_restrained``) adds a
constant to sigma alpha A, and m = B cos((alpha - w)/2) to w''. With n = B sin((alpha - w)/2), m' = w' n/2 and n' = -w' m/2.

S = sin w and C = cos w obey S' = w' C and C' = -w' S. A cosine A = g, with H = A sin(phase), obeys g' = -Omega H and H' = Omega g.
So the coefficients follow one from another. A sum starts with what is known first, so that little is left to do when the last
coefficient is there: this halves the time. The source of the kernels is
made here, because a loop over an array costs as much as the series itself. A short series ends with zeros.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import fma  # noqa: F401  the source of the kernels uses it

ORDER = 20
# Order up to the next corner of the base acceleration, if that is near.
SHORT_ORDER = 12
# Order of steps whose error is not bounded.
BRIEF_ORDER = 8


class Term(NamedTuple):
    """Product of two names in the source, and the step of the recursion after which it is known."""

    known: int
    one: str
    other: str


def chain(terms: list[Term]) -> str:
    """Return the source of a sum of products in this order, by fused multiplications and additions."""
    *before, last = terms
    return f"fma({last.one}, {last.other}, {chain(before)})" if before else f"{last.one} * {last.other}"


def total(terms: list[Term]) -> str:
    """Return the source of a sum of products: first the terms that are known first, in two parts, and the last one at the end."""
    *early, last = sorted(terms, key=lambda term: term.known)
    if len(early) < 3:
        return chain([*early, last])
    return f"fma({last.one}, {last.other}, {chain(early[0::2])} + {chain(early[1::2])})"


def lines_of_block(
    later: Callable[[str, int], list[Term]], order: int, weight: str = "", restrained: bool = False
) -> list[str]:
    """Return the source lines that compute dk = k wk, k = 2, 3, ..., from w1, s0, c0 and the base acceleration.

    ``later`` gives the terms of the forcing without that of g0. tk = k sk and rk = -k ck are sums that wait for dk. So the next
    one, d(k + 2), uses them at once. ``weight`` is the source of a factor of s, such as "f0 * ". If ``restrained``, w'' contains m.
    """
    lines = ["d1 = w1", f"d2 = fma(g0, c0, {weight}s0)" + (" + m0" if restrained else "")]
    for k in range(1, order - 1):
        for name, other in (("t", "c"), ("r", "s")):
            lines.append(
                f"{name}{k} = {total([Term(max(j - 2, k - j), f'd{j}', f'{other}{k - j}') for j in range(1, k + 1)])}"
            )
        per = 1.0 / (k * (k + 1))
        lines += [
            f"s{k}, c{k} = t{k} * {1.0 / k!r}, r{k} * {-1.0 / k!r}",
            f"d{k + 2} = fma({weight}t{k}, {per!r}, fma(r{k}, g0 * {-per!r}, ({total(later('c', k))}) * {1.0 / (k + 1)!r}))",
        ]
        if restrained:
            lines += [*half_angle_lines(k), f"d{k + 2} = fma(m{k}, {1.0 / (k + 1)!r}, d{k + 2})"]
    return lines


def half_angle_lines(k: int) -> list[str]:
    """Return the source of mk and nk."""
    sums = [total([Term(j, f"d{j}", f"{other}{k - j}") for j in range(1, k + 1)]) for other in "nm"]
    return [f"m{k}, n{k} = ({sums[0]}) * {0.5 / k!r}, ({sums[1]}) * {-0.5 / k!r}"]


def straight_line(name: str, arguments: str, lines: list[str], document: str) -> Any:
    """Return a kernel with these source lines."""
    body = "\n".join(f"    {line}" for line in lines)
    scope: dict[str, Any] = {}
    exec(f'def {name}({arguments}):\n    """{document}"""\n{body}\n', globals(), scope)
    return kernel(scope[name])


def coefficients(order: int) -> str:
    """Return the source of wk = dk/k, k = 2, 3, ..., times the scale, with zeros beyond the order."""
    return (
        "("
        + ", ".join(
            [f"d{k} * (scale * {1.0 / k!r})" for k in range(2, order + 1)] + ["0.0"] * (ORDER - order)
        )
        + ")"
    )


def wave_lines(order: int, first: str = "g0") -> list[str]:
    """Return the source of the coefficients of a cosine, whose ``first`` one may be a part of g0."""
    lines = []
    for k in range(1, order - 1):
        lines += [
            f"g{k} = h{k - 1} * (frequency * {-1.0 / k!r})",
            f"h{k} = {first if k == 1 else f'g{k - 1}'} * (frequency * {1.0 / k!r})",
        ]
    return lines


def cosine_lines(order: int = ORDER) -> list[str]:
    """Return the source of the series under a cosine."""
    return wave_lines(order) + lines_of_block(cosine_terms, order)


def restrained_cosine_lines(order: int = ORDER) -> list[str]:
    """Return the source of the series of a restrained block under a cosine plus a constant push."""
    return [*wave_lines(order, "(g0 - push)"), *lines_of_block(cosine_terms, order, "f0 * ", True)]


def restrained_linear_lines(order: int = ORDER) -> list[str]:
    """Return the source of the series of a restrained block under a + rate t."""
    return lines_of_block(linear_terms, order, "f0 * ", True)


def linear_lines(order: int = ORDER) -> list[str]:
    """Return the source of the series under a + rate t."""
    return lines_of_block(linear_terms, order)


def cosine_terms(factor: str, k: int) -> list[Term]:
    """Return the terms of coefficient k of the product of a cosine and a ``factor``, s or c, without that of g0."""
    return [Term(k - j, f"g{j}", f"{factor}{k - j}") for j in range(1, k + 1)]


def linear_terms(factor: str, k: int) -> list[Term]:
    """Return the terms of coefficient k of the product of a + rate t and a ``factor``, s or c, without that of a."""
    return [Term(k - 1, "rate", f"{factor}{k - 1}")] if k else []


def biaxial_lines(order: int = ORDER) -> list[str]:
    """Return the source of the series under a + rate t, with the weight f0 + lift t."""
    return lines_of_block(biaxial_terms, order, "f0 * ")


def biaxial_terms(factor: str, k: int) -> list[Term]:
    """Return ``linear_terms``, with those of lift: of c that of lift s, and of s that of -lift c."""
    if k == 0:
        return []
    lift = Term(k - 1, "lift", f"s{k - 1}") if factor == "c" else Term(k - 1, "-lift", f"c{k - 1}")
    return [*linear_terms(factor, k), lift]


def transfer_lines(
    later: Callable[[str, int], list[Term]], weight: str = "", restrained: bool = False
) -> list[str]:
    """Return the source of two solutions of x'' = (cos w - sigma alpha A sin w) x, the equation of small perturbations.

    x starts with (x, x') = (1, 0), y with (0, 1). ``later`` gives the terms of the forcing without that of g0, and ``weight`` is a factor
    of cos w. If ``restrained``, the factor of x contains n/2.
    """
    lines = ["x0, x1, y0, y1 = 1.0, 0.0, 0.0, 1.0"]
    for k in range(ORDER - 1):
        more = f" + 0.5 * n{k}" if restrained else ""
        lines.append(f"q{k} = {weight}c{k} - ({total([Term(k, 'g0', f's{k}'), *later('s', k)])}){more}")
        for name in "xy":
            terms = total([Term(max(j, k - j - 2), f"q{j}", f"{name}{k - j}") for j in range(k + 1)])
            lines.append(f"{name}{k + 2} = ({terms}) * {1.0 / ((k + 1) * (k + 2))!r}")
    both = ", ".join("(" + ", ".join(f"{name}{k}" for k in range(2, ORDER + 1)) + ")" for name in "xy")
    return [*lines, f"return {both}"]


def series_kernel(name: str, base: str, lines: Callable[[int], list[str]], order: int) -> Any:
    """Return the kernel of a series up to an order, with the arguments of the ``base`` acceleration."""
    document = "Return w2, w3, ... times a scale."
    body = [*lines(order), f"return {coefficients(order)}"]
    return straight_line(name, f"w1, s0, c0, scale, {base}", body, document)


cosine_series = series_kernel("cosine_series", "g0, h0, frequency", cosine_lines, ORDER)
short_cosine_series = series_kernel("short_cosine_series", "g0, h0, frequency", cosine_lines, SHORT_ORDER)
linear_series = series_kernel("linear_series", "g0, rate", linear_lines, ORDER)
short_linear_series = series_kernel("short_linear_series", "g0, rate", linear_lines, SHORT_ORDER)
brief_linear_series = series_kernel("brief_linear_series", "g0, rate", linear_lines, BRIEF_ORDER)
biaxial_series = series_kernel("biaxial_series", "g0, rate, f0, lift", biaxial_lines, ORDER)
short_biaxial_series = series_kernel("short_biaxial_series", "g0, rate, f0, lift", biaxial_lines, SHORT_ORDER)
brief_biaxial_series = series_kernel("brief_biaxial_series", "g0, rate, f0, lift", biaxial_lines, BRIEF_ORDER)
restrained_cosine_series, short_restrained_cosine_series = (
    series_kernel(
        f"{name}restrained_cosine_series",
        "g0, h0, push, frequency, f0, m0, n0",
        restrained_cosine_lines,
        order,
    )
    for name, order in (("", ORDER), ("short_", SHORT_ORDER))
)
restrained_series, short_restrained_series, brief_restrained_series = (
    series_kernel(f"{name}restrained_series", "g0, rate, f0, m0, n0", restrained_linear_lines, order)
    for name, order in (("", ORDER), ("short_", SHORT_ORDER), ("brief_", BRIEF_ORDER))
)
cosine_transfer = straight_line(
    "cosine_transfer",
    "w1, s0, c0, g0, h0, frequency",
    [*cosine_lines(), *transfer_lines(cosine_terms)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` under a cosine.",
)
linear_transfer = straight_line(
    "linear_transfer",
    "w1, s0, c0, g0, rate",
    [*linear_lines(), *transfer_lines(linear_terms)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` under a linear acceleration.",
)
biaxial_transfer = straight_line(
    "biaxial_transfer",
    "w1, s0, c0, g0, rate, f0, lift",
    [*biaxial_lines(), *transfer_lines(biaxial_terms, "f0 * ")],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` under linear accelerations in two directions.",
)
restrained_cosine_transfer = straight_line(
    "restrained_cosine_transfer",
    "w1, s0, c0, g0, h0, push, frequency, f0, m0, n0",
    [*restrained_cosine_lines(), *transfer_lines(cosine_terms, "f0 * ", True)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` for a restrained block under a cosine.",
)
restrained_transfer = straight_line(
    "restrained_transfer",
    "w1, s0, c0, g0, rate, f0, m0, n0",
    [*restrained_linear_lines(), *transfer_lines(linear_terms, "f0 * ", True)],
    "Return x2, x3, ... and y2, y3, ... of the solutions of ``transfer_lines`` for a restrained block under a linear acceleration.",
)


def polynomial_lines(first: int, order: int = ORDER) -> list[str]:
    """Return the source of the value and the derivative of the terms from t^``first`` on, divided by t^``first``.

    Even and odd terms are two sums, with their derivatives by t^2. This halves the latency.
    """
    names = ["a", "b", *(f"w[{k}]" for k in range(order - 1))][first:]
    lines = ["s = t * t"]
    for part in range(2):
        last, *others = names[part::2][::-1]
        lines.append(f"p{part}, q{part} = {last}, 0.0")
        for name in others:
            lines += [f"q{part} = fma(q{part}, s, p{part})", f"p{part} = fma(p{part}, s, {name})"]
    return [*lines, "return fma(p1, t, p0), fma(2.0 * t, fma(q1, t, q0), p1)"]


def divided(first: int) -> Any:
    """Return the kernel of a + b t + w2 t^2 + ..., divided by t^``first``: the known zeros at the start are taken out exactly."""
    document = f"Return the polynomial divided by t^{first}, and its derivative."
    return straight_line(f"divided_{first}", "a, b, w, t", polynomial_lines(first), document)


def bend_lines(first: int) -> list[str]:
    """Return the source of the bound of the second derivative of ``divided`` on [0, h], in two sums as ``polynomial_lines``."""
    names = ["a", "b", *(f"w[{k}]" for k in range(ORDER - 1))]
    lines = ["s = h * h", "p0, p1 = 0.0, 0.0"]
    for k in range(ORDER, first + 1, -1):
        part = f"p{(k - first) % 2}"
        lines.append(f"{part} = fma({part}, s, {float((k - first) * (k - first - 1))!r} * abs({names[k]}))")
    return [*lines, "return fma(p1, h, p0)"]


def bend(first: int) -> Any:
    """Return the kernel that bounds the second derivative of ``divided`` on [0, h]."""
    document = f"Bound the second derivative of the polynomial divided by t^{first}."
    return straight_line(f"bend_{first}", "a, b, w, h", bend_lines(first), document)


def jerk_lines() -> list[str]:
    """Return the source of the bound on [0, h] of the third derivative, less its value at 0, in two sums."""
    lines = ["s = h * h", "p0, p1 = 0.0, 0.0"]
    for k in range(ORDER, 3, -1):
        part = f"p{k % 2}"
        lines.append(f"{part} = fma({part}, s, {float(k * (k - 1) * (k - 2))!r} * abs(w[{k - 2}]))")
    return [*lines, "return fma(p1, h, p0) * h"]


jerk = straight_line(
    "jerk", "w, h", jerk_lines(), "Bound the change of the third derivative of the polynomial on [0, h]."
)
divided_0, divided_1, divided_2, divided_3 = (divided(first) for first in range(4))
brief_divided_1 = straight_line(
    "brief_divided_1",
    "a, b, w, t",
    polynomial_lines(1, BRIEF_ORDER),
    "Return ``divided_1`` of a series of order BRIEF_ORDER.",
)
short_divided_1 = straight_line(
    "short_divided_1",
    "a, b, w, t",
    polynomial_lines(1, SHORT_ORDER),
    "Return ``divided_1`` of a short series.",
)
bend_0, bend_1, bend_2, bend_3 = (bend(first) for first in range(4))


def shifted_lines() -> list[str]:
    """Return the source of the polynomial in the time since t, by repeated synthetic division."""
    lines = ["p0, p1, p2 = a, b, second", *(f"p{k} = w[{k - 2}]" for k in range(3, ORDER + 1))]
    for first in range(ORDER):
        lines += [f"p{k} = fma(t, p{k + 1}, p{k})" for k in range(ORDER - 1, first - 1, -1)]
    return [*lines, f"return p0, p1, ({', '.join(f'p{k}' for k in range(2, ORDER + 1))})"]


shifted = straight_line(
    "shifted",
    "a, b, second, w, t",
    shifted_lines(),
    "Return a + b t + second t^2 + w3 t^3 + ... in the time since t.",
)


def size_lines(order: int) -> list[str]:
    """Return the source of the sums of |w_k| r^k from k = 1 on, and of k (k - 1) |w_k| r^(k - 2).

    Even and odd orders are two sums, which halves the latency.
    """
    lines = ["s = r * r", "y0, z0, y1, z1 = 0.0, 0.0, 0.0, 0.0"]
    for k in range(order, 1, -1):
        y, z, w = f"y{k % 2}", f"z{k % 2}", f"abs(w[{k - 2}])"
        lines += [f"{y} = fma({y}, s, {w})", f"{z} = fma({z}, s, {float(k * (k - 1))!r} * {w})"]
    return [*lines, "return fma(y1, s, fma(y0, r, abs(b))) * r, fma(z1, r, z0)"]


def sizes_up_to(name: str, order: int) -> Any:
    """Return the kernel of the bounds of a series up to an order, and of its second derivative, on a circle of radius r."""
    document = "Return the sums of |w_k| r^k and of k (k - 1) |w_k| r^(k - 2)."
    return straight_line(name, "b, w, r", size_lines(order), document)


sizes, short_sizes = sizes_up_to("sizes", ORDER), sizes_up_to("short_sizes", SHORT_ORDER)


def derivative_lines() -> list[str]:
    """Return the source of the coefficients of the derivative, of the same form, times a sign."""
    later = ", ".join(f"sign * ({k + 1}.0 * w[{k - 1}])" for k in range(2, ORDER))
    return [f"return sign * b, sign * (2.0 * w[0]), ({later}, 0.0)"]


negative = straight_line(
    "negative",
    "w",
    [f"return {', '.join(f'-w[{k}]' for k in range(ORDER - 1))}"],
    "Return the coefficients times -1.",
)
derivative = straight_line(
    "derivative",
    "b, w, sign",
    derivative_lines(),
    "Return the derivative of a + b t + w2 t^2 + ..., times a sign, in this form.",
)
