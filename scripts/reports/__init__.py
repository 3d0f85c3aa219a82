"""What `reproduce_reports.py` writes: every figure and table of the two reports, with right figures."""
