"""The nonlinear programme of a design: unknowns, constraints, objective."""
