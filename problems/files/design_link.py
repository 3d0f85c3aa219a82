"""A problem and a design of it as a link that a mail can carry, read back to the last digit."""

from __future__ import annotations

import base64
import binascii
import json
import re
import zlib
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote

from grashof.problems.values.errors import ProblemError
from grashof.problems.values.text import file_name

MARK = "design="  # in the fragment of the address, before the packed problem and design
_MOST_BYTES = 1_000_000  # unpacked
_NOT_ALL = "is damaged or cut off; copy all of it, to its last character"
_FOREIGN = "has no design of grashof live in its fragment"


@dataclass(frozen=True, slots=True)
class SharedDesign:
    """The problem and the design of a link.

    Parameters
    ----------
    name : str
        Name of the problem, valid as a file name.
    document : dict
        The problem file, as JSON.
    linkage : str
        The design as a linkage file, TOML; empty for a problem alone.
    """

    name: str
    document: dict[str, Any]
    linkage: str = ""


def design_link(shared: SharedDesign, page: str) -> str:
    """The link of a problem and its design, at the address of a page.

    Examples
    --------
    >>> link = design_link(SharedDesign("mine", {"kind": "path"}), "http://127.0.0.1/")
    >>> link[:25], read_link(link)
    ('http://127.0.0.1/#design=', SharedDesign(name='mine', document={'kind': 'path'}, linkage=''))
    """
    content = {"name": shared.name, "problem": shared.document, "linkage": shared.linkage}
    text = json.dumps(content, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
    packed = base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip("=")
    return f"{page}#{MARK}{packed}"


def is_link(text: str) -> bool:
    """Whether a text looks like the link of a design, or its fragment."""
    return MARK in _fragment(text)


def read_link(text: str) -> SharedDesign:
    """The problem and the design of a link, which a mail may have broken into lines.

    `ProblemError` where it is damaged, not the link of a design, or larger than a megabyte.
    """
    found = re.search(rf"{MARK}([\w-]*)", _fragment(text), re.ASCII)
    if found is None:
        raise ProblemError(f"the link {_FOREIGN}")
    packed = _unpacked(found[1])
    try:
        content = json.loads(packed)
    except (ValueError, RecursionError):
        raise ProblemError(f"the link {_FOREIGN}") from None
    keys = {"name": str, "problem": dict, "linkage": str}
    if not isinstance(content, dict) or not all(isinstance(content.get(key), keys[key]) for key in keys):
        raise ProblemError(f"the link {_FOREIGN}")
    return SharedDesign(file_name(content["name"]), content["problem"], content["linkage"])


def _fragment(text: str) -> str:
    """The text after the #, without the line breaks and quoting of mails."""
    return re.sub(r"\s", "", unquote(text)).partition("#")[2]


def _unpacked(packed: str) -> bytes:
    """The JSON in a link; `ProblemError` where its checksum or its length is wrong."""
    reader = zlib.decompressobj()
    try:
        content = reader.decompress(base64.urlsafe_b64decode(packed + "=" * (-len(packed) % 4)), _MOST_BYTES)
    except (binascii.Error, zlib.error):
        raise ProblemError(f"the link {_NOT_ALL}") from None
    if len(content) == _MOST_BYTES:
        raise ProblemError(f"the link has more than {_MOST_BYTES} bytes")
    if not reader.eof or reader.unused_data:
        raise ProblemError(f"the link {_NOT_ALL}")
    return content
