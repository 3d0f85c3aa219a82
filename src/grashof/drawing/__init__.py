"""A linkage as every drawing has it, whatever the medium: links, joints, slides, tracks."""
