"""How designs are found: starts, the CasADi programme, Ipopt, verification, ranking."""

import logging

from lazy_loader import attach_stub

logging.getLogger("grashof").addHandler(
    logging.NullHandler()
)  # the program that imports it decides about logging

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
