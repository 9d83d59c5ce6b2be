// Addresses whose packets the programs drop, since no member of the site is known there: from the reasons in
// system/status, as `saphira status` shows them.
export interface Stranger {address: string; packets: number; during: number; ago: number; by: string[]}  // [s]

const begin = 'strangers are kept out: ';
const one = /(?:^|, )([^,()]+) \((\d+) packets in (\d+) s, the last (\d+) s ago\)/y;

// Of several programs the one that has heard most counts, and the newest packet.
export function strangersIn(statuses: {name: string; reason: string}[]): Stranger[] {
  const all = new Map<string, Stranger>();
  for (const {name, reason} of statuses) {
    const at = reason.indexOf(begin);
    const text = at < 0 ? '' : reason.slice(at + begin.length);
    one.lastIndex = 0;
    for (let found = one.exec(text); found; found = one.exec(text)) {
      const [packets, during, ago] = found.slice(2).map(Number), address = found[1], known = all.get(address);
      all.set(address, {
        address, packets: Math.max(packets, known?.packets ?? 0), during: Math.max(during, known?.during ?? 0),
        ago: Math.min(ago, known?.ago ?? Infinity), by: [...known?.by ?? [], name],
      });
    }
  }
  return [...all.values()].sort((a, b) => b.packets - a.packets);
}
