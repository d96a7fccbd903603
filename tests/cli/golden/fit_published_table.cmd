flightwatt fit "$SOURCE"/logs/opterra_synthetic_0?.data --published "$SOURCE/fits/mechanical/opterra-table1.toml" --table table1.csv -o model.toml > shown.txt || exit
sed 's/,.*//' table1.csv; ls
