"""Writes the pages that ParaView's button for help shows, one a proxy, from server-manager XML.

python help_pages.py FOLDER XML...

ParaView's own way from XML to pages loses those with a bracket, as in "[0, 1]", and those of proxies
with a class of their own.
"""

import sys
from html import escape
from pathlib import Path
from xml.etree import ElementTree


def text_of(element):
    return " ".join((element.findtext("Documentation") or "").split())


def described(element):
    """Its documentation; what is said of each choice as a list."""
    first, *choices = escape(text_of(element)).split(" - ")
    items = "".join(f"<li>{choice}</li>" for choice in choices)
    return first + (f"<ul>{items}</ul>" if items else "")


def table(elements):
    rows = "".join(
        f"<tr><th align='left'>{each.get('name')}</th><td>{each.get('default_values') or ''}</td>"
        f"<td>{described(each)}</td></tr>"
        for each in elements
    )
    return (
        "<table width='97%' border='1' cellspacing='0' cellpadding='4'>"
        "<tr><th align='left' width='30%'>Property</th><th align='left' width='10%'>Default</th>"
        f"<th align='left'>What it is</th></tr>{rows}</table>"
    )


def sections(proxy):
    """The tables of the panel's groups, after that of what has no group."""
    properties = {each.get("name"): each for each in proxy if each.tag.endswith("Property")}
    groups = {
        group.get("label"): [properties.pop(each.get("name")) for each in group]
        for group in proxy.iter("PropertyGroup")
    }
    titled = "".join(f"<h3>{escape(label)}</h3>{table(each)}" for label, each in groups.items())
    return table(properties.values()) + titled if properties else titled


def page(proxy):
    label = escape(proxy.get("label"))
    about = proxy.find("Documentation")
    outputs = [escape(port.get("name")) for port in proxy.findall("OutputPort")]
    ports = f"<p>Outputs: <i>{'</i>, <i>'.join(outputs)}</i>.</p>" if outputs else ""
    return (
        f"<html><head><title>{label}</title></head><body><h2>{label}</h2>"
        f"<p>{escape(about.get('long_help'))} {escape(text_of(proxy))}</p>{ports}{sections(proxy)}"
        "</body></html>\n"
    )


def main(folder, *files):
    Path(folder).mkdir(parents=True, exist_ok=True)
    for file in files:
        for group in ElementTree.parse(file).iter("ProxyGroup"):
            for proxy in group:
                name = f"{group.get('name')}.{proxy.get('name')}.html"
                Path(folder, name).write_text(page(proxy), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
