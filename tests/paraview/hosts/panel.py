"""What ParaView knows of the panels of the plugin's proxies. Arguments: the answer file, the proxies' names."""

import sys

from paraview import simple
from session import answer


def groups_of(proxy):
    """The headings, each with the properties below it."""
    groups = [proxy.GetPropertyGroup(i) for i in range(proxy.GetNumberOfPropertyGroups())]
    return [
        [each.GetXMLLabel(), [proxy.GetPropertyName(each.GetProperty(i)) for i in range(each.GetNumberOfProperties())]]
        for each in groups
    ]  # fmt: skip


def property_of(proxy, name):
    described = proxy.GetProperty(name)
    return {
        "documentation": described.GetDocumentation().GetDescription(),
        "visibility": described.GetPanelVisibility(),
    }


def values_of(source):
    own = [
        name for name in source.ListProperties() if name not in ("Input", "Mirror", "ImageScalars")
    ]
    return {name: str(getattr(source, name)) for name in own}


def change_all(source):
    """Another value for each property that is one number."""
    for name in values_of(source):
        value = getattr(source, name)
        if isinstance(value, (int, float)):
            setattr(source, name, type(value)(1 - value if value in (0, 1) else value / 2))


answers = {}
for name in sys.argv[2:]:
    simple.Sphere()
    source = getattr(simple, name)()
    proxy = source.SMProxy
    before = values_of(source)
    change_all(source)
    changed = values_of(source)
    proxy.ResetPropertiesToXMLDefaults()
    names = source.ListProperties()
    answers[name] = {
        "documentation": [proxy.GetDocumentation().GetShortHelp(), proxy.GetDocumentation().GetLongHelp()],
        "groups": groups_of(proxy),
        "properties": {each: property_of(proxy, each) for each in names},
        "before": before,
        "changed": changed,
        "reset": values_of(source),
    }  # fmt: skip
answer(answers)
