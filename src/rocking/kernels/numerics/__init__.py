"""Elementary functions, series and averages: numbers in, numbers out, no physics."""
