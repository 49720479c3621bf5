"""No module needs itself by way of others, not even for the name of a type."""

from graphlib import TopologicalSorter

import grimp


def test_there_is_no_circle_of_imports():
    graph = grimp.build_graph("vbraille", cache_dir=None)
    imports = {name: graph.find_modules_directly_imported_by(name) for name in graph.modules}
    assert len(imports) > 100
    order = TopologicalSorter(imports).static_order()  # CycleError names the circle
    assert set(order) == set(imports)
