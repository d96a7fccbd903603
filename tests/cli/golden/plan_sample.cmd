cp -r "$SOURCE/fits" "$SOURCE/missions" .
sed -i 's/^reserve_soc_percent = .*/reserve_soc_percent = 2/; s/^slot_s = .*/slot_s = 60/' missions/paper/plan.toml
flightwatt plan missions/paper/plan.toml -o schedule.toml || exit
cat schedule.toml
flightwatt simulate schedule.toml --step 688
