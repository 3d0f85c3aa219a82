"""The effort that moves a linkage by hand, with struts and springs, and its deviation from the wanted one."""
