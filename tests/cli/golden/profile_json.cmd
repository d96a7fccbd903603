printf '100,101,102\n4,1,1\n6,1,1\n' > a.csv
printf '100,101,102\n9,1,1\n' > b.csv
printf '[combinations]\na.csv=1\nb.csv=2\nname=m2l.csv\n' > c.cfg
flightwatt profile c.cfg -o out --json --powprofiler && cat out/powprofiler/m2l.csv
