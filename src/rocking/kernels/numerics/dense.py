"""Small dense linear systems and copies of arrays, in place: without allocation, an array between, or a library call."""

from rocking.kernels.library.kernel import kernel


@kernel
def solve(matrix, right, n):
    """Solve the leading n x n system by Gaussian elimination with row pivots; ``right`` becomes the solution.

    Returns False if the system is singular.
    """
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if not abs(matrix[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for j in range(k, n):
                matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
            right[k], right[pivot] = right[pivot], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    matrix[i, j] -= factor * matrix[k, j]
                right[i] -= factor * right[k]
    for i in range(n - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, n):
            total -= matrix[i, j] * right[j]
        right[i] = total / matrix[i, i]
    return True


@kernel(inline=True)
def copy_into(target, source):
    """Write the numbers of one array into another of the same length."""
    for k in range(source.shape[0]):
        target[k] = source[k]
