"""A linkage as drawings in any medium show it: links, joints, slides, tracks."""
