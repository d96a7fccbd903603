mkdir empty
printf '[components.a]\ncommand = ["true"]\n' > spec.toml
flightwatt profile spec.toml -o out --sysfs empty
