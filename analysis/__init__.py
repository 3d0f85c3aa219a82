"""How a given linkage moves and how good it is: the independent judge of the synthesis, without CasADi."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
