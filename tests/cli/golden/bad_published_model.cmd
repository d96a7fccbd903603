echo 'name = "x"' > model.toml
flightwatt fit "$SOURCE/logs/opterra_synthetic_02.data" --published model.toml -o result.toml; code=$?; ls; exit $code
