"""The effort that moves a linkage by hand, with struts and springs, and how far it is from the wanted one."""
