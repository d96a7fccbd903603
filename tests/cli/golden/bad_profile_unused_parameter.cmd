printf '[components.a]\ncommand = ["a", "{fsp}"]\nqos = { fps = [1, 2] }\n' > spec.toml
flightwatt profile spec.toml -o out
