"""Figures of linkages and designs for papers and notebooks, and moving ones, with matplotlib.

Every function draws into the axes given as ``ax``, or else into a new figure of pyplot, and returns
the axes; none of them shows or saves anything. A linkage is a `FourBar`, a `LinkageSpec` as
`load_linkage_spec` reads it, or a `Candidate` of a result; with a `Problem` its task is drawn, and
unit, speed and masses are the problem's. Fonts are those of matplotlib's settings; `save` writes text
as text, and the same bytes each time.
"""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
