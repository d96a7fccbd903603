flightwatt fit "$SOURCE/logs/opterra_synthetic_02.data" > model.toml || exit
sed 's/= .*//' model.toml
