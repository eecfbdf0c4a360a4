"""Command `rocking`: each file of `commands` parses options, calls one public function and prints its result."""
