flightwatt fit --level-covariate windiness "$SOURCE/logs/opterra_synthetic_01.data"
