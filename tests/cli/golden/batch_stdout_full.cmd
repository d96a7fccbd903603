flightwatt batch "$SOURCE/logs/opterra_synthetic_01.data" -o out > /dev/full
