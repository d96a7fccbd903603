sed 's/^a0_w = 27\.21.*/a0_w = 1e308/' "$SOURCE/fits/mechanical/opterra-table1.toml" > model.toml
flightwatt synthesize model.toml -o made; code=$?; ls; exit $code
