flightwatt battery "$SOURCE"/logs/opterra_synthetic_01.data "$SOURCE"/logs/opterra_synthetic_01.data
