"""Parts of all reports: claims with verdicts, the page, tables as files, and the loop that writes them."""
