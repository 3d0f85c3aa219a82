"""Struts and springs placed so that the effort of a linkage comes closest to the wanted one."""
