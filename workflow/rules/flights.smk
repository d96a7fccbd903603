# Logs to one model: chunks of logs, the batch of each, their folders joined as a tree, one fit of all.


# Looks for logs at each run of the workflow: `--forcerun cut_chunks` makes it look again. A log keeps its chunk.
checkpoint cut_chunks:
    output:
        f"{OUT}/chunks.txt",
    params:
        logs=config["logs"],
        chunk_mb=config["chunk_mb"],
        chunk_logs=config["chunk_logs"],
        lists=f"{OUT}/lists",
    script:
        "../scripts/cut_chunks.py"


def chunk_folders():
    with open(checkpoints.cut_chunks.get().output[0]) as chunks:
        return [f"{OUT}/chunks/{chunk.strip()}" for chunk in chunks]


def merge_tree():
    """The folders that each merge joins, by its node LEVEL-NUMBER, and those that the last one does."""
    folders, nodes, level = chunk_folders(), {}, 0
    while len(folders) > config["merge_folders"]:
        joined = []
        for first in range(0, len(folders), config["merge_folders"]):
            node = f"{level}-{len(joined)}"
            nodes[node] = folders[first : first + config["merge_folders"]]
            joined.append(f"{OUT}/merges/{node}")
        folders, level = joined, level + 1
    return nodes, folders


def joined_by(wildcards):
    return merge_tree()[0][wildcards.node]


def joined_last(wildcards):
    return merge_tree()[1]


def done(folders):
    return lambda wildcards: [f"{folder}.done" for folder in folders(wildcards)]


# The batch's folder is not an output of the rule: Snakemake would remove it when a job fails, and a job that is
# restarted does only what is not in it yet.
rule batch:
    input:
        f"{OUT}/lists/{{chunk}}.txt",
    output:
        f"{OUT}/chunks/{{chunk}}.done",
    params:
        program=FLIGHTWATT,
        folder=f"{OUT}/chunks/{{chunk}}",
        # No log of the rule: Snakemake would empty it when the job is done again.
        log=f"{OUT}/chunks/{{chunk}}.log",
    threads: config["chunk_threads"]
    script:
        "../scripts/batch_chunk.py"


rule merge:
    input:
        done(joined_by),
    output:
        f"{OUT}/merges/{{node}}.done",
    params:
        folders=joined_by,
        out=f"{OUT}/merges/{{node}}",
    log:
        f"{OUT}/merges/{{node}}.log",
    shell:
        "{FLIGHTWATT} merge {params.folders} --prune -o {params.out} > {log} 2>&1 && touch {output}"


# The folder of all flights, as one batch of all logs would have left it.
rule merge_all:
    input:
        done(joined_last),
    output:
        f"{OUT}/flights.csv",
    params:
        folders=joined_last,
        out=f"{OUT}/all",
    log:
        f"{OUT}/merge.log",
    shell:
        "{FLIGHTWATT} merge {params.folders} --prune -o {params.out} > {log} 2>&1 && cp {params.out}/flights.csv {output}"


rule fit:
    input:
        f"{OUT}/flights.csv",
    output:
        model=f"{OUT}/model.toml",
        table=f"{OUT}/table1.csv",
    log:
        f"{OUT}/fit.log",
    shell:
        "{FLIGHTWATT} fit {OUT}/all --model-kind best --name batch {config[fit_options]} -o {output.model} --table {output.table}"
        " > {log} 2>&1"


rule validate_flights:
    input:
        f"{OUT}/flights.csv",
    output:
        f"{OUT}/validation.json",
    params:
        program=FLIGHTWATT,
        folder=f"{OUT}/all",
        flights=config["validation_flights"],
    log:
        f"{OUT}/validation.log",
    script:
        "../scripts/validate_some.py"
