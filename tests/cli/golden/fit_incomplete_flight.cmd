# No landing in any flight: no model, and none is left.
head -c 300674 "$SOURCE/logs/opterra_synthetic_01.data" > flight.data; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
flightwatt fit flight.data -o model.toml; code=$?; ls; exit $code
