"""Frozen, validated values: block, base motion, system, state, verdict, and the results of surveys.

Every subpackage except `kernels` imports this one. It also holds the validation of arguments, the atomic
replacement of files and the images of results in notebooks.
"""
