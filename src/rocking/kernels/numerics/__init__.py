"""Elementary functions, series and averages: numerics without mechanics."""
