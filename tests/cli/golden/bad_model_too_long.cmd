sed 's/^duration_s = 28.*/duration_s = 1e12/' "$SOURCE/fits/mechanical/opterra-table1.toml" > model.toml
flightwatt synthesize model.toml -o made; code=$?; ls; exit $code
