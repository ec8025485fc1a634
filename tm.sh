tmux kill-server 2>/dev/null; tmux new-session -d -s d -x 100 -y 45 "/tmp/fresh/scripts/dinal"
sleep 2
while IFS= read -r l; do tmux send-keys -t d -l "$l"; tmux send-keys -t d Enter; sleep 0.6; done < in.txt
sleep 1; tmux capture-pane -t d -p -S -200 | head -150
tmux kill-server
