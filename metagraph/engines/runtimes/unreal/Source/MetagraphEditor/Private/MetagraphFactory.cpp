#include "MetagraphFactory.h"

#include "MetagraphAsset.h"
#include "Misc/FeedbackContext.h"
#include "Misc/FileHelper.h"
#include "Misc/Paths.h"

UMetagraphFactory::UMetagraphFactory()
{
	SupportedClass = UMetagraphAsset::StaticClass();
	bCreateNew = false;
	bEditorImport = true;
	ImportPriority = DefaultImportPriority + 10; // before the factories of other JSON, which FactoryCanImport leaves theirs
	Formats.Add(TEXT("json;Metagraph export"));
}

bool UMetagraphFactory::FactoryCanImport(const FString& Filename)
{
	FString Text;
	return FPaths::GetExtension(Filename) == TEXT("json") && FFileHelper::LoadFileToString(Text, *Filename)
		&& Text.Contains(TEXT("\"metagraph\"")) && Text.Contains(TEXT("\"randomness\""));
}

UObject* UMetagraphFactory::FactoryCreateFile(
	UClass* InClass, UObject* InParent, FName InName, EObjectFlags Flags, const FString& Filename, const TCHAR*,
	FFeedbackContext* Warn, bool& bOutOperationCanceled)
{
	bOutOperationCanceled = false;
	TArray<uint8> Json;
	TArray<uint8> Glb;
	const FString GlbName = FPaths::ChangeExtension(Filename, TEXT("glb"));
	if (!FFileHelper::LoadFileToArray(Json, *Filename) || !FFileHelper::LoadFileToArray(Glb, *GlbName))
	{
		Warn->Logf(ELogVerbosity::Error, TEXT("Metagraph: %s cannot be read. The GLB that was exported with the JSON should lie beside it."), *GlbName);
		return nullptr;
	}
	UMetagraphAsset* Made = NewObject<UMetagraphAsset>(InParent, InClass, InName, Flags);
	Made->SourceFile = Filename;
	if (!Made->Take(FPaths::GetCleanFilename(Filename), Json, Glb))
	{
		Warn->Logf(ELogVerbosity::Error, TEXT("Metagraph: %s"), *Made->Problem);
		return nullptr;
	}
	return Made;
}
