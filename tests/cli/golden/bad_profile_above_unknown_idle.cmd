printf 'idle_s = 0\n[components.a]\ncommand = ["a"]\n' > spec.toml
flightwatt profile spec.toml -o out --above-idle
