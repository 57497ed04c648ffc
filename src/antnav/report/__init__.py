"""What reports are made of, and how they are written: tables, statistics, pictures; Markdown, HTML, LaTeX, CSV."""
