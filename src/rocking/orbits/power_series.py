"""Truncated power series in one variable, for many functions at once: exact derivatives of closed forms.

A series is an array whose last axis holds its coefficients, of equal length in all arguments (Griewank and Walther 2008, ch. 13).
"""

from __future__ import annotations

import numpy as np


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the product of two series."""
    out = np.zeros_like(a * b)
    for m in range(out.shape[-1]):
        out[..., m] = (a[..., : m + 1] * b[..., m::-1]).sum(axis=-1)
    return out


def quotient(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the quotient of two series."""
    out = np.array(a)
    for m in range(out.shape[-1]):
        known = (b[..., 1 : m + 1] * out[..., :m][..., ::-1]).sum(axis=-1)
        out[..., m] = (out[..., m] - known) / b[..., 0]
    return out


def exponential(a: np.ndarray) -> np.ndarray:
    """Return the exponential function of a series."""
    out, slope = np.zeros_like(a), a * np.arange(a.shape[-1])
    out[..., 0] = np.exp(a[..., 0])
    for m in range(1, a.shape[-1]):
        out[..., m] = (slope[..., 1 : m + 1] * out[..., :m][..., ::-1]).sum(axis=-1) / m
    return out


def cosine_and_sine(a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the cosine and the sine of a series."""
    cosine, sine, slope = np.zeros_like(a), np.zeros_like(a), a * np.arange(a.shape[-1])
    cosine[..., 0], sine[..., 0] = np.cos(a[..., 0]), np.sin(a[..., 0])
    for m in range(1, a.shape[-1]):
        cosine[..., m] = -(slope[..., 1 : m + 1] * sine[..., :m][..., ::-1]).sum(axis=-1) / m
        sine[..., m] = (slope[..., 1 : m + 1] * cosine[..., :m][..., ::-1]).sum(axis=-1) / m
    return cosine, sine
