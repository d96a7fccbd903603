flightwatt battery "$SOURCE"/logs/opterra_synthetic_01.data --capacity 3.2 --cells 3 -o pack.toml
