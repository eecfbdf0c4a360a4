"""The command `rocking`: one file a command, each of which parses, calls one public function and shows what it returns."""
