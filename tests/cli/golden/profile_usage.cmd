flightwatt profile missing.toml
printf '[components.a]\ncommand = ["true"]\n' > spec.toml
flightwatt profile spec.toml spec.toml -o out
flightwatt profile spec.toml -o out --sysfs nowhere
flightwatt profile spec.toml -o out --sampler voltmeter
flightwatt profile spec.toml -o out --sampler command
flightwatt profile spec.toml -o out --parameters a
