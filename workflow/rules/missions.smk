# Missions on the model of the flights: a mission that names OUT/model.toml flies the new one, so all wait for it.

import types


def mission_to_fly(wildcards):
    if wildcards.mission in TO_PLAN:
        return f"{OUT}/missions/{wildcards.mission}.plan.toml"
    return MISSIONS[wildcards.mission]


rule plan:
    input:
        mission=lambda wildcards: TO_PLAN[wildcards.mission],
        model=f"{OUT}/model.toml",
    output:
        f"{OUT}/missions/{{mission}}.plan.toml",
    log:
        f"{OUT}/missions/{{mission}}.plan.log",
    shell:
        "{FLIGHTWATT} plan {input.mission} -o {output} > {log} 2>&1"


rule simulate:
    input:
        mission=mission_to_fly,
        model=f"{OUT}/model.toml",
    output:
        summary=f"{OUT}/missions/{{mission}}.simulation.json",
        series=f"{OUT}/missions/{{mission}}.simulation.csv",
    params:
        samples=f"--samples {config['samples']}" if config["samples"] else "",
    log:
        f"{OUT}/missions/{{mission}}.simulation.log",
    shell:
        "{FLIGHTWATT} simulate {input.mission} {params.samples} --json -o {output.series} > {output.summary} 2> {log}"


# A page of all flights has some 12 kB a flight.
rule report:
    input:
        flights=f"{OUT}/flights.csv",
        missions=[mission_to_fly(types.SimpleNamespace(mission=mission)) for mission in MISSIONS],
        model=f"{OUT}/model.toml",
    output:
        f"{OUT}/report.html",
    params:
        batch=f"{OUT}/all" if config["report"] == "flights" else "",
    log:
        f"{OUT}/report.log",
    shell:
        "{FLIGHTWATT} report {params.batch} {input.missions} -o {output} > {log} 2>&1"
