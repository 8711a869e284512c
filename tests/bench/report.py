"""Turns Google Benchmark's JSON into the text and tables of docs/benchmarks.md."""
import json
import re
import subprocess
import sys


def output_of(*command):
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return "unknown processor"


def commit():
    name = output_of("git", "rev-parse", "--short", "HEAD") or "unknown"
    changed = output_of("git", "status", "--porcelain", "--untracked-files=no", "--", "core", "api")
    return name + (" with changes" if changed else "")


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("| " + " | ".join(["---"] + ["---:"] * (len(heads) - 1)) + " |")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def count(number):
    return f"{number:,.0f}"


def load(path):
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    runs = {}
    for run in document["benchmarks"]:
        words = run["name"].split("/")
        arguments = dict(re.findall(r"(\w+):(\d+)", run["name"]))
        key = (words[0], *(int(arguments[k]) for k in ("decades", "fold", "full", "plain") if k in arguments))
        runs[key] = run
    return document["context"], runs


def milliseconds(run):
    return f"{run['real_time']:.3g}" if run["real_time"] < 1000 else count(run["real_time"])


def head(context):
    average = context.get("load_avg", [0])[0]
    print(
        f"""# Benchmarks

Written by `tests/bench/report.sh`. Times are wall-clock times of one thread.

- Machine: {processor()}, {context['num_cpus']} processors
- Compiler: {output_of('g++', '--version').splitlines()[0]}, `-O3 -DNDEBUG -ffp-contract=off`
- Commit: {commit()}
- Load average at the start: {average:.2f}"""
        + (
            "; **other programs ran on the machine, the times are too long**\n"
            if average > 1.5
            else "\n"
        )
    )
    print(
        """The model is a flange: a disc with a bore and n round holes. An area bound sets the number of
triangles; the angle bound is 30°. *plain* is Delaunay refinement alone (`--plain`); *default* moves
vertices first and coarsens afterwards, which gives fewer triangles for the same bounds.
"""
    )


def refinement(runs):
    print(
        """## Refinement

n = 6. "Cell" meshes the symmetry cell, "whole" the same model with `--fold 1`. Time of refinement and
coarsening; µs are per triangle that was made.
"""
    )
    sizes = sorted({key[2] for key in runs if key[0] == "refine"})
    rows = []
    for plain in (1, 0):
        for size in sizes:
            cell, whole = runs[("refine", 6, size, plain)], runs[("refine", 1, size, plain)]
            rows.append(
                [
                    "plain" if plain else "default",
                    count(cell["full"]),
                    count(cell["cell"]),
                    milliseconds(cell),
                    f"{cell['us_per_cell_triangle']:.2f}",
                    milliseconds(whole),
                    f"{whole['us_per_cell_triangle']:.2f}",
                    f"{whole['real_time'] / cell['real_time']:.1f}",
                ]
            )
    table(
        ["mode", "full mesh", "cell", "cell, ms", "µs", "whole, ms", "µs", "whole / cell"],
        rows,
    )
    for plain, name in ((1, "plain"), (0, "default")):
        per = [runs[("refine", 6, size, plain)]["us_per_cell_triangle"] for size in (sizes[0], sizes[-1])]
        print(
            f"Growth of the cost per cell triangle from the smallest to the largest, {name}: "
            f"{per[1] / per[0]:.2f}."
        )
    print()


def restoration(runs):
    print(
        """## Restoring the full mesh

"Nodes and elements": positions of all nodes and node ids of all elements, as every writer gets them.
"VTU": the whole document, raw, to a sink that drops it.
"""
    )
    rows = []
    for name, text in (("restore", "nodes and elements"), ("restore_vtu", "VTU")):
        for fold in (6, 48):
            run = runs[(name, fold)]
            rows.append([text, str(fold), count(run["full"]), f"{1e9 * run['s_per_triangle']:.1f}"])
    table(["what", "n", "triangles", "ns a triangle"], rows)


def detection(runs):
    print(
        """## Finding the symmetry

A ring of 3,000 vertices with a wavy rim, by the tolerance of symmetry (a share of the model's diameter).
"""
    )
    fewest = runs[("detect", 6)]["real_time"]
    rows = []
    for decades in range(6, 0, -1):
        run = runs[("detect", decades)]
        rows.append([f"1e-{decades}", milliseconds(run), f"{run['real_time'] / fewest:.1f}"])
    table(["tolerance", "ms", "times the first"], rows)


def whole_model(runs):
    print(
        """## Against a mesher of the whole model

Model to full mesh, n = 6, the same bounds on angle and area for all: the symmetry found, the cell
meshed, the full mesh streamed as VTU to a sink that drops it; and CGAL's `Delaunay_mesher_2` on the
whole model, in memory.
"""
    )
    cgal = runs[("whole_model_cgal",)]
    rows = []
    for key, text in (
        (("cell_and_restoration", 1), "symcell, plain"),
        (("cell_and_restoration", 0), "symcell, default"),
        (("whole_model_cgal",), "CGAL"),
    ):
        run = runs[key]
        rows.append(
            [
                text,
                count(run["full"]),
                milliseconds(run),
                f"{cgal['real_time'] / run['real_time']:.1f}",
            ]
        )
    table(["mesher", "triangles", "ms", "times as fast as CGAL"], rows)


def files(runs):
    print(
        """## A large full mesh in a file

`symcell mesh` as a process of its own, n = 48, full mesh as raw VTU to a file.
"""
    )
    rows = []
    for plain, text in ((1, "plain"), (0, "default")):
        run = runs[("full_file", plain)]
        rows.append(
            [
                text,
                count(run["full"]),
                f"{run['real_time'] / 1000:.2f}",
                f"{run['peak_mib']:.0f}",
                f"{run['file_mib']:.0f}",
            ]
        )
    table(["mode", "triangles", "s", "peak memory, MiB", "file, MiB"], rows)


def main():
    context, runs = load(sys.argv[1])
    head(context)
    refinement(runs)
    restoration(runs)
    detection(runs)
    whole_model(runs)
    files(runs)


if __name__ == "__main__":
    main()
