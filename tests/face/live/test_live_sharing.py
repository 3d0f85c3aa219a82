"""Links and texts copied by the live page, opened in another page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from live_pages import keys, searched, shown
from shown_pages import state

from grashof.problems import load_linkage_spec, problem_text
from grashof.problems.files.linkage_writing import mail_toml
from grashof.problems.files.on_disk import document_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

WARNING = "document.querySelector('[data-warning]').textContent"


def copied(page: Page, what: str) -> str:
    page.locator("[data-menu=copy] summary").click()
    page.locator(f"[data-copy={what}]").click()
    words = {"link": "The link to the design", "linkage": "The design", "problem": "The problem"}[what]
    shown(page, f"document.querySelector('[data-shared] output').textContent.startsWith({words!r})")
    return page.locator("[data-shared] textarea").input_value()


@pytest.mark.slow
def test_a_copied_link_opens_the_same_design_and_the_copied_file_is_it(
    page: Page, browser: Browser, served: str
) -> None:
    page.locator(".listing tbody tr").nth(2).click()
    before = state(page)
    (sent,) = [each["linkage"] for each in before["designs"] if each["key"] == before["chosen"]]
    link = copied(page, "link")
    assert served.split("#")[1] not in link
    text = copied(page, "linkage")
    assert text == mail_toml(load_linkage_spec(link))
    assert {"mechanism": "four-bar", **load_linkage_spec(link).linkage.stated} == sent
    problem = document_of(copied(page, "problem"), "copied.toml")
    assert problem["motion"]["poses"] == before["document"]["motion"]["poses"]
    other = browser.new_page()
    try:
        other.goto(f"{served}&{link.split('#')[1]}")
        first = shown(other, "s.designs.length")
        assert first["designs"][0]["linkage"] == sent
        found = searched(other)
        (kept,) = [each["linkage"] for each in found["designs"] if each["key"] == found["chosen"]]
        assert kept == sent
        assert found["document"] == before["document"]
        assert other.evaluate("location.hash") == f"#{served.split('#')[1]}"
        other.locator("tr[data-target='1'] [data-cell=x]").fill("3.4")
        other.locator("tr[data-target='1'] [data-cell=x]").press("Enter")
        searched(other)
        other.evaluate(f"location.hash = {link.split('#')[1]!r}")  # pasted into the address bar
        again = shown(other, "s.document.motion.poses[1][0] === 3.5")
        assert (
            other.locator("tr[data-target='1'] [data-cell=x]").input_value() == "3.5"
        )  # which has the focus
        assert again["designs"][0]["linkage"] == sent
    finally:
        other.close()


@pytest.mark.slow
@pytest.mark.parametrize("link", ["design=eNqNUsuO2zAM", "design=%E0%A4%A", "design="])
def test_a_damaged_link_is_a_line_on_a_page_that_works(browser: Browser, served: str, link: str) -> None:
    page = browser.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    try:
        page.goto(f"{served}&{link}")
        found = searched(page)
        assert found["document"] == document_of(problem_text("luggage"), "luggage.toml")
        assert keys(found)
        assert page.locator("[data-warning]").inner_text().startswith("the link is damaged")
        page.locator("[data-menu=open] summary").click()
        page.locator("[name=link]").fill("http://example.com/#elsewhere")
        page.locator("[data-link] button").click()
        shown(page, f"{WARNING}.startsWith('the link has no design')")
        assert state(page)["document"] == found["document"]
        page.locator("tr[data-target='1'] [data-cell=x]").fill("3.4")
        page.locator("tr[data-target='1'] [data-cell=x]").press("Enter")
        shown(page, f"{WARNING} === ''")
        assert errors == []
    finally:
        page.close()


@pytest.mark.slow
def test_without_a_token_a_link_says_where_to_open_it(browser: Browser, served: str) -> None:
    page = browser.new_page()
    try:
        page.goto(f"{served.split('#')[0]}#design=abc")
        page.wait_for_selector("[data-warning]:not([hidden])")
        assert "open the address that grashof live prints" in page.locator("[data-warning]").inner_text()
    finally:
        page.close()
