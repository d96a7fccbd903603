flightwatt fit "$SOURCE"/logs/opterra_synthetic_0?.data -o model.toml || exit
grep -c weight model.toml; head -n 5 model.toml
