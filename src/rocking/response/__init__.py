"""Analysis of responses: sections, spectra, Lyapunov exponents, dimensions, rotation numbers and classification."""
