mkdir out
flock out flightwatt batch "$SOURCE/logs/opterra_synthetic_01.data" -o out; code=$?; ls out; exit $code
