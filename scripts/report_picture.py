"""Make the picture of the page for the documentation: solve the luggage problem and take a screenshot.

Needs Chromium and the package playwright (`pip install playwright`).
"""

import argparse
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from playwright.sync_api import sync_playwright

from grashof import load, synthesize
from grashof.output.run_files import write_run

PICTURE = Path(__file__).parents[1] / "docs" / "report.png"


def take_picture(page: Path, picture: Path, browser: str) -> None:
    """Screenshot of a page, with the linkage in motion and drawn at the targets."""
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        tab = chromium.new_page(viewport={"width": 1200, "height": 925}, color_scheme="light")
        tab.goto(page.resolve().as_uri())
        tab.check("#ghosts")
        tab.select_option("#targets", "1")
        tab.locator("#stage").focus()
        tab.keyboard.press("Shift+ArrowRight")
        tab.evaluate("document.activeElement.blur()")
        picture.parent.mkdir(parents=True, exist_ok=True)
        tab.screenshot(path=picture)
        chromium.close()


def main(argv: Sequence[str] | None = None) -> int:
    """Write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "picture", nargs="?", type=Path, default=PICTURE, help="PNG; docs/report.png by default."
    )
    chosen = parser.parse_args(argv)
    found = (shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome"))
    browser = next((name for name in found if name), None)
    if browser is None:
        print("no Chromium on this machine, so no picture", file=sys.stderr)
        return 3
    with TemporaryDirectory() as folder:
        write_run(Path(folder), synthesize(load("luggage")), {}, drawings=0)
        take_picture(Path(folder) / "report.html", chosen.picture, browser)
    return 0


if __name__ == "__main__":
    sys.exit(main())
