"""``python -m rocking.kernels [CLASS...]``: compile the kernels into the library of the package, unless it is up to date."""

from rocking.kernels.library.build import main

main()
