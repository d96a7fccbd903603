flightwatt battery "$SOURCE"/logs/opterra_synthetic_01.data --capacity 0
