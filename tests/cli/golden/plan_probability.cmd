cp -r "$SOURCE/fits" "$SOURCE/missions" .
flightwatt fit "$SOURCE"/logs/*.data -o fits/mechanical/opterra-table1.toml 2> /dev/null > /dev/null || exit
sed -i 's/^reserve_soc_percent = .*/reserve_soc_percent = 1/' missions/paper/plan.toml
for p in 0.5 0.8 0.9; do flightwatt plan missions/paper/plan.toml --probability $p 2>&1 > schedule.toml | sed 's/(gap .*;/;/'; done
