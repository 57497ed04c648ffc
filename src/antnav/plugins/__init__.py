"""What users add: the files and packages that define it, and digests of its code."""
