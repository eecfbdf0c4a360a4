"""SIMD lanes: many blocks in lockstep, one block per lane of the vector registers."""
