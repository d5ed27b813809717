// The core, C++17 of the standard library alone, kept apart from Unreal's macros. For this module's sources only.
#pragma once

#include "CoreMinimal.h"

THIRD_PARTY_INCLUDES_START
#pragma push_macro("PI")
#pragma push_macro("check")
#pragma push_macro("verify")
#undef PI
#undef check
#undef verify
#include "Core/metagraph.hpp"
#pragma pop_macro("verify")
#pragma pop_macro("check")
#pragma pop_macro("PI")
THIRD_PARTY_INCLUDES_END

/** A graph that characters share. */
struct FMetagraphGraph
{
	metagraph::Ref<const metagraph::Graph> Graph;
};

/** What a parameter is set to. */
struct FMetagraphValue
{
	metagraph::Json Value;
};

/** A character of the core, and what it says with gestures; the latter refers to the former, so it stays where it is. */
struct FMetagraphCharacter
{
	metagraph::Character Character;
	metagraph::Talk Talk;

	FMetagraphCharacter(
		const metagraph::Ref<const metagraph::Graph>& Graph, const metagraph::CharacterOptions& Options, const metagraph::TalkOptions& Words)
		: Character(Graph, Options), Talk(Character, Words)
	{
	}

	FMetagraphCharacter(const FMetagraphCharacter&) = delete;
	FMetagraphCharacter& operator=(const FMetagraphCharacter&) = delete;
};

namespace MetagraphText
{
	inline std::string Plain(const FString& Text)
	{
		const FTCHARToUTF8 Converted(*Text);
		return std::string(Converted.Get(), static_cast<std::size_t>(Converted.Length()));
	}

	inline FString Unreal(const std::string& Text)
	{
		return FString(UTF8_TO_TCHAR(Text.c_str()));
	}
}
