"""Tables and curves of the benchmarks."""


def seconds_text(value):
    seconds, beyond = value
    return "-" if seconds is None else f"{'~' if beyond else ''}{seconds:.3g}"


def print_scene(result, targets):
    reference = result["reference"]
    print(f"\n{result['scene']}: reference of {reference['seeds']} seeds of {reference['spp']} samples by {reference['by']}, "
          f"its own relMSE {reference['floor']:.2g}, its mean known to {100 * reference['relative_error_of_mean']:.3f} %")
    print(f"  {'renderer':<32}{'spp':>7}{'seconds':>10}{'relMSE':>11}{'trimmed':>11}{'FLIP':>8}   bias")
    for name, ladder in result["rows"].items():
        for row in ladder:
            mark = "" if row["used"] else "  below twice the reference's own"
            print(f"  {name:<32}{row['spp']:>7}{row['seconds']:>10.3f}{row['rel_mse']:>11.3g}{row['trimmed']:>11.3g}"
                  f"{row['flip']:>8.4f}   {100 * row['bias']:+.3f} % +- {100 * row['bias_error']:.3f}{mark}")
    print(f"  {'renderer':<32}{'set-up s':>9}{'slope':>8}{'gain':>7}" + "".join(f"{f's to {t:g}':>13}" for t in targets))
    for name, summary in result["summary"].items():
        slope = "-" if summary["slope"] is None else f"{summary['slope']:.2f}"
        gain = "-" if summary["gain"] is None else f"{summary['gain']:.2f}"
        print(f"  {name:<32}{result['setup_seconds'][name]:>9.2f}{slope:>8}{gain:>7}"
              + "".join(f"{seconds_text(summary['seconds_to'][str(t)]):>13}" for t in targets), flush=True)


def ratio_to_best_peer(result, target):
    """Best peer's seconds over Wavelobe's, and the peer's name."""
    seconds = {name: s["seconds_to"][str(target)][0] for name, s in result["summary"].items()}
    ours = seconds.pop("wavelobe")
    peers = {name: value for name, value in seconds.items() if value is not None}
    if ours is None or not peers:
        return None, None
    best = min(peers, key=peers.get)
    return peers[best] / ours, best


def print_summary(results, targets):
    print("\nTimes sooner than the best peer\n" + f"{'scene':<24}" + "".join(f"{f'{t:g}':>10}  {'peer':<32}" for t in targets))
    for result in results:
        line = f"{result['scene']:<24}"
        for target in targets:
            ratio, best = ratio_to_best_peer(result, target)
            line += f"{'-' if ratio is None else f'{ratio:.2f}':>10}  {best or '':<32}"
        print(line)


def finish(plot, figure, axes, folder, name):
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=8)
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.{kind}" for kind in ("png", "svg")]
    for path in paths:
        figure.savefig(path, dpi=130)
    plot.close(figure)
    return paths


def draw(result, targets, folder):
    """Time against error, log-log, all renderers, as PNG and SVG."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    figure, axes = plot.subplots(figsize=(7, 5), constrained_layout=True)
    for name, ladder in result["rows"].items():
        points = [(r["seconds"], r["rel_mse"]) for r in ladder if r["used"] and r["rel_mse"] > 0]
        if not points:
            continue
        slope = result["summary"][name]["slope"]
        label = name if slope is None else f"{name} (slope {slope:.2f})"
        axes.plot(*zip(*points), marker="o", markersize=4, linewidth=2.2 if name == "wavelobe" else 1.2, label=label)
    for target in targets:
        axes.axhline(target, color="grey", linewidth=0.6, linestyle=":")
    axes.axhline(2 * result["reference"]["floor"], color="red", linewidth=0.6, linestyle="--", label="twice the reference's own")
    # What independent samples would do from the first point on.
    first = result["rows"]["wavelobe"][0]
    low, high = axes.get_xlim()
    axes.plot([first["seconds"], high], [first["rel_mse"], first["rel_mse"] * first["seconds"] / high],
              color="grey", linewidth=0.6, label="slope -1")
    axes.set(xscale="log", yscale="log", xlabel="render seconds", ylabel="relMSE",
             title=f"{result['scene']}, {result['size']} x {result['size']}, {result['threads']} threads")
    return finish(plot, figure, axes, folder, f"{result['scene']}-{result['threads']}")


def draw_traversal(result, folder):
    """Nanoseconds a bounce ray against the triangles of the rooms, one thread, as PNG and SVG; nothing without matplotlib."""
    rows = [r for r in result["rows"] if r["threads"] == 1 and r["mesh"].startswith("room-")]
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is absent: no plot (apt-get install python3-matplotlib)")
        return []
    if len(rows) < 2:
        return []
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    figure, axes = plot.subplots(figsize=(7, 5), constrained_layout=True)
    for rays, style in (("bounce1", "-"), ("bounce3", "--")):
        for key, label in (("ours", "wavelobe"), ("embree_best_robust", "Embree, robust"), ("embree_best", "Embree")):
            points = [(r["triangles"], 1e3 / r[key]) for r in rows if r["rays"] == rays]
            axes.plot(*zip(*points), style, marker="o", markersize=4, linewidth=2.2 if key == "ours" else 1.2, label=f"{label}, {rays}")
    axes.set(xscale="log", xlabel="triangles", ylabel="ns a ray", title="Closest hits of bounce rays in a closed room, one thread")
    return finish(plot, figure, axes, folder, "traversal")
