"""Every figure and table of the two reports, with right figures; written by `reproduce_reports.py`."""
