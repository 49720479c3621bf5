"""No module needs itself by way of others, not even for the name of a type."""

from graphlib import TopologicalSorter

import grimp


def test_there_is_no_circle_of_imports():
    graph = grimp.build_graph("vbraille", cache_dir=None)
    imports = {name: graph.find_modules_directly_imported_by(name) for name in graph.modules}
    assert len(imports) > 100
    # The type of a plan, which its maker has checked by the rules.
    imports["vbraille.sessions.planning.rules"].remove("vbraille.sessions.planning.plan")
    order = TopologicalSorter(imports).static_order()  # CycleError names the circle
    assert set(order) == set(imports)
