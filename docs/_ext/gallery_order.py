"""The order of the examples: motions, paths, strokes and functions, then analysis and theory."""

from __future__ import annotations

ORDER = (
    *("luggage", "hood_hinge", "garage_door", "bed_lifter", "pick_and_place", "cylinder_lift"),
    *("straight_line", "film_advance", "walking_leg", "slider_crank_path", "kinds_compared", "twelve_points"),
    *("wiper", "quick_return", "logarithm", "excavator_bucket"),
    *("pumpjack", "forces", "tolerance", "burmester"),
)


class Order:
    """Key that sorts the files of a folder of examples, as sphinx-gallery wants it; there is only one."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, filename: str) -> tuple[int, str]:
        """Place of a file."""
        name = filename.removeprefix("plot_").removesuffix(".py")
        return (ORDER.index(name) if name in ORDER else len(ORDER), name)

    def __repr__(self) -> str:  # part of sphinx-gallery's configuration, which is compared between builds
        return "<gallery_order.Order>"
