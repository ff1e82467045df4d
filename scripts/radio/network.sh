# SPDX-License-Identifier: BSD-3-Clause
# Three hosts that share one radio, as network namespaces; sourced by radio_test. Nothing in them
# can reach another network: there is no link out of the namespaces made here.
#
#   station --tx-->|            |--rx--> station
#   a       --tx-->| in ==> out |--rx--> a
#   b       --tx-->|            |--rx--> b
#
# Whatever a host sends passes `in ==> out` once, which alone is shaped: what one host sends, and
# every acknowledgement, is missing to the others, as on a radio channel. Each host's packets wait
# in a queue of their own, and the channel goes round among the hosts that have some. (One queue for
# all, as a plain tbf has, would let a large frame of a delay b's packets, which no radio does.)
# shellcheck shell=bash

hosts=(station a b)
declare -A address=([station]=10.77.0.1 [a]=10.77.0.2 [b]=10.77.0.3)
prefix=rprr_radio_$$

space() { echo "${prefix}_$1"; }
# in_host HOST COMMAND...
in_host() {
  local host=$1
  shift
  ip netns exec "$(space "$host")" "$@"
}

# What is missing on this machine to make a radio, in words; nothing if nothing is.
why_no_radio() {
  local tool
  for tool in ip tc; do
    command -v "$tool" >/dev/null || { echo "$tool is not installed (Debian: iproute2)" && return; }
  done
  [[ $(id -u) -eq 0 ]] || { echo "network namespaces need root" && return; }
  local probe=${prefix}_probe reason=''
  ip netns add "$probe" 2>/dev/null || { echo "network namespaces cannot be made here" && return; }
  if ! ip -n "$probe" link add air type veth peer name there 2>/dev/null; then
    reason="the kernel has no veth interfaces"
  elif ! ip netns exec "$probe" tc qdisc add dev air root handle 1: htb 2>/dev/null ||
    ! ip netns exec "$probe" tc filter add dev air parent 1: protocol ip u32 \
      match ip src 10.77.0.1 flowid 1:1 2>/dev/null; then
    reason="the kernel has no htb queue or no u32 filter (modules sch_htb, cls_u32)"
  fi
  ip netns del "$probe"
  echo "$reason"
}

# A quiet namespace that forwards: no IPv6, no checks of where packets come from.
make_space() {
  local name
  name=$(space "$1")
  ip netns add "$name"
  ip -n "$name" link set lo up
  ip netns exec "$name" sysctl -qw net.ipv6.conf.all.disable_ipv6=1 \
    net.ipv6.conf.default.disable_ipv6=1 net.ipv4.conf.all.rp_filter=0 \
    net.ipv4.conf.default.rp_filter=0 net.ipv4.ip_forward="$2" \
    net.ipv4.conf.all.send_redirects=0 net.ipv4.conf.default.send_redirects=0
}

# make_link SPACE NAME MAC SPACE NAME MAC: a cable. Packets are never larger than on a wire, so that
# counters count what a radio would carry.
make_link() {
  ip -n "$(space "$1")" link add name "$2" type veth peer name "$5" netns "$(space "$4")"
  ip -n "$(space "$1")" link set dev "$2" address "$3" gso_max_segs 1 up
  ip -n "$(space "$4")" link set dev "$5" address "$6" gso_max_segs 1 up
}

# Neighbours are given: no address resolution crosses the radio.
make_network() {
  local rate_kbit=$1 host number=0 ip
  make_space in 1
  make_space out 1
  make_link in air 02:77:00:00:01:01 out air 02:77:00:00:01:02
  ip -n "$(space in)" neigh add 10.77.1.2 lladdr 02:77:00:00:01:02 dev air nud permanent
  ip -n "$(space in)" route add 10.77.0.0/24 via 10.77.1.2 dev air onlink
  for host in "${hosts[@]}"; do
    number=$((number + 1)) ip=${address[$host]}
    make_space "$host" 0
    make_link "$host" tx "02:77:00:00:02:0$number" in "from_$host" "02:77:00:00:03:0$number"
    make_link out "to_$host" "02:77:00:00:04:0$number" "$host" rx "02:77:00:00:05:0$number"
    ip -n "$(space "$host")" address add "$ip/32" dev tx
    ip -n "$(space "$host")" neigh add 10.77.1.1 lladdr "02:77:00:00:03:0$number" dev tx \
      nud permanent
    # cubic is what Linux uses by default; another default of this machine must not matter.
    ip -n "$(space "$host")" route add 10.77.0.0/24 via 10.77.1.1 dev tx onlink src "$ip" \
      congctl cubic
    ip -n "$(space out)" neigh add "$ip" lladdr "02:77:00:00:05:0$number" dev "to_$host" \
      nud permanent
    ip -n "$(space out)" route add "$ip/32" dev "to_$host"
  done
  shape "$rate_kbit"
}

# One capacity for all; a third of it is a host's own, and what others leave as well.
shape() {
  local rate=$1 share=$(($1 / 3)) host number=0 queue
  queue=$((rate * 1000 / 8 / 4)) # a quarter of a second, but 16 full packets at least
  ((queue > 24224)) || queue=24224
  local tc=(ip netns exec "$(space in)" tc)
  "${tc[@]}" qdisc add dev air root handle 1: htb default 11
  "${tc[@]}" class add dev air parent 1: classid 1:1 htb rate "${rate}kbit" ceil "${rate}kbit" \
    burst 3200 cburst 3200 quantum 1514
  for host in "${hosts[@]}"; do
    number=$((number + 1))
    "${tc[@]}" class add dev air parent 1:1 classid "1:1$number" htb rate "${share}kbit" \
      ceil "${rate}kbit" burst 1600 cburst 1600 quantum 1514
    "${tc[@]}" qdisc add dev air parent "1:1$number" handle "1$number:" bfifo limit "$queue"
    "${tc[@]}" filter add dev air parent 1: protocol ip u32 match ip src "${address[$host]}/32" \
      flowid "1:1$number"
  done
}

# Bytes and packets of every host and direction, as JSON.
counters() {
  local host sent received separator=''
  printf '{'
  for host in "${hosts[@]}"; do
    sent=$(in_host "$host" ip -s -j link show tx)
    received=$(in_host "$host" ip -s -j link show rx)
    printf '%s"%s": {"tx": %s, "rx": %s}' "$separator" "$host" "$sent" "$received"
    separator=', '
  done
  printf '}\n'
}

# Ends what still runs in the namespaces of this script, and takes them away.
remove_network() {
  local name pids i
  for name in $(ip netns list 2>/dev/null | awk '{print $1}' | grep "^${prefix}_" || true); do
    for i in TERM KILL; do
      pids=$(ip netns pids "$name" 2>/dev/null || true)
      [[ -z $pids ]] || { kill "-$i" $pids 2>/dev/null && sleep 0.5; } || true
    done
    ip netns del "$name" 2>/dev/null || true
  done
}
