"""The figures that the page's sentences quote, from the measurements, so that they are of the same run as the pictures."""


def between(values, form="{:.1f}"):
    """"1.2 to 3.4"; one figure where both would be written alike."""
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def settings(of, method, name=None):
    return [row for row in of["settings"] if row["method"] == method and name in (None, row["setting"])]


def of_methods(cloth, hard):
    kernel = [row for of in cloth["sets"] for row in settings(of, "kernel", "0 m")]
    batches = [row for of in cloth["sets"] for row in settings(of, "kernel in batches", "0 m")]
    lost = [min(row["misses"] for row in settings(of, "textbook")) / of["touching"] for of in hard["sets"] if of["touching"]]
    worst = max(hard["sets"], key=lambda of: settings(of, "kernel", "0 m")[0]["off_p99"])
    return {
        "cloth_batches": between([row["ratio"] for row in batches], "{:.2f}"),
        "cloth_kernel": between([row["ratio"] for row in kernel], "{:.2f}"),
        "cloth_misses": sum(row["misses"] for of in cloth["sets"] for method in ("kernel", "kernel in batches")
                            for row in settings(of, method)),
        "cloth_alarms": sum(row["false_alarms"] for row in kernel + batches),
        "hard_misses": sum(row["misses"] for of in hard["sets"] for method in ("kernel", "inclusion", "exact")
                           for row in settings(of, method)),
        "cloth_off": f"{max(row['off_p99'] for row in kernel):.1e}",
        "hard_lost": f"{100 * max(lost):.0f} %",
        "hard_off": f"{settings(worst, 'kernel', '0 m')[0]['off_p99']:.1e}",
        "hard_off_class": worst["name"],
    }


def of_checker(verify):
    times, memory, shares = [], [], []
    for sheet in verify["sheets"]:
        one = {method["name"]: method for method in sheet["methods"] if method["threads"] == 1}
        shares += [method["exact"] / method["examined"] for method in one.values() if method["examined"]]
        if "cgal" in one:
            times.append(one["cgal"]["check_ns"]["cpu"] / one["frame"]["check_ns"]["cpu"])
            memory.append(one["cgal"]["peak_bytes"] / one["frame"]["peak_bytes"])
    against = f"CGAL takes {between(times)} times as long as the frame check, in {between(memory)} times its memory"
    return {"checker_against_cgal": against if times else "CGAL was not measured", "most_exact": f"{100 * max(shares):.2g} %"}


def detection(motion, name):
    """Refit and query on one thread; building again where a method has no refit."""
    for method in motion["methods"]:
        if method["name"] == name and method["threads"] == 1:
            return (method["refit_ns"]["cpu"] or method["build_ns"]["cpu"]) + method["query_ns"]["cpu"]
    return None


def of_broad_phase(broad, crumple):
    def pairs(motion):
        return motion["vf"] + motion["ee"]

    quoted = {"pairs_a_face": between([pairs(motion) / motion["faces"] for motion in broad["motions"]])}
    libraries = []
    for name, title in (("embree", "Embree"), ("cgal", "CGAL")):
        times = [detection(motion, name) / detection(motion, "automatic") for motion in broad["motions"]
                 if detection(motion, name)]
        libraries.append(f"{title} takes {between(times, '{:.0f}')} times as long" if times else f"{title} was not measured")
    quoted["libraries"] = " and ".join(libraries)
    largest = max(motion["faces"] for motion in crumple["motions"])
    crumpled = sorted((motion for motion in crumple["motions"] if motion["faces"] == largest), key=pairs)
    quoted["more_pairs"] = f"{pairs(crumpled[-1]) / pairs(crumpled[0]):.1f}"
    quoted["more_time"] = f"{detection(crumpled[-1], 'automatic') / detection(crumpled[0], 'automatic'):.1f}"
    return quoted


def of_simulator(sim):
    fewest = {solver: min(row["substeps"] for row in sim["time_steps"] if row["solver"] == solver)
              for solver in ("explicit", "implicit")}
    quoted = {"longer_steps": fewest["explicit"] // fewest["implicit"]}
    for solver in ("explicit", "implicit"):
        rows = [row for row in sim["growth"] if row["solver"] == solver and row["threads"] == 1]
        first, last = (rows[i]["ms_a_step"] / rows[i]["vertices"] for i in (0, -1))
        quoted[f"growth_{solver}"] = f"{last / first:.1f}"
    return quoted


def quoted(reports):
    return {**of_methods(reports["cloth"], reports["hard"]), **of_checker(reports["verify"]),
            **of_broad_phase(reports["broad"], reports["crumple"]), **of_simulator(reports["sim"])}
