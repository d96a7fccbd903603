cp "$SOURCE"/logs/opterra_synthetic_01.data f.data
sed 's/MilliAmpereOfAdc(_adc)/MILLIAMP_AT_FULL_THROTTLE/' "$SOURCE"/logs/opterra_synthetic_01.log > f.log
flightwatt battery f.data "$SOURCE"/logs/opterra_synthetic_02.data --capacity 3.2 -o pack.toml
