/** The address without a token, which would stay in histories and logs; undefined: there is none in it. */
export function withoutToken(href: string): string | undefined {
  const address = new URL(href);
  const names = [...address.searchParams.keys()].filter((name) => name.toLowerCase() === "token");
  if (names.length === 0) return undefined;
  for (const name of names) address.searchParams.delete(name);
  return address.href;
}
