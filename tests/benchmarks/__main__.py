"""Print the README's table of speeds."""

from tests.benchmarks import bench_render, bench_text

print("| what | bar | got |\n|---|---|---|")
for module in (bench_render, bench_text):
    for result in module.run():
        print(result.row(), flush=True)
