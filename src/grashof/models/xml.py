"""Elements of XML files."""

from __future__ import annotations

import xml.etree.ElementTree as ET


def add(parent: ET.Element, tag: str, **attributes: str) -> ET.Element:
    """Add an element to another one."""
    return ET.SubElement(parent, tag, attributes)
