# Logs to one model: chunks of logs, the batch of each, their catalogues joined, one fit of all.


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


def chunk_folders(wildcards):
    with open(checkpoints.cut_chunks.get().output[0]) as chunks:
        return [f"{OUT}/chunks/{chunk.strip()}" for chunk in chunks]


def finished_chunks(wildcards):
    return [f"{folder}.done" for folder in chunk_folders(wildcards)]


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


rule catalogue:
    input:
        finished_chunks,
    output:
        f"{OUT}/flights.csv",
    params:
        folders=chunk_folders,
    script:
        "../scripts/join_catalogues.py"


# All chunks by their folder, in which only chunks are: the names of ten thousand are long.
rule fit:
    input:
        finished_chunks,
    output:
        model=f"{OUT}/model.toml",
        table=f"{OUT}/table1.csv",
    log:
        f"{OUT}/fit.log",
    shell:
        "{FLIGHTWATT} fit {OUT}/chunks/*/ --name batch {config[fit_options]} -o {output.model} --table {output.table}"
        " > {log} 2>&1"


rule validate_flights:
    input:
        finished_chunks,
    output:
        f"{OUT}/validation.json",
    params:
        program=FLIGHTWATT,
        folders=chunk_folders,
        flights=config["validation_flights"],
    log:
        f"{OUT}/validation.log",
    script:
        "../scripts/validate_some.py"
